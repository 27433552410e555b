#include <cstdio>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include "real/realSet.h"
#include <visp3/vlp_identification/vpLedDetector.h>
int main(int argc,char**argv){
  RealSet set(argv[1]); double claim=argc>2?atof(argv[2])*1e-6:0; int half=argc>3?atoi(argv[3]):170;
  cv::Mat all; std::vector<cv::Mat> tiles;
  for(const YAML::Node &image:set.images()){
    vpVlpFrame f=set.frame(image); vpVlpRig rig=set.rig(image,f,claim); vpLampMap map=set.map();
    vpLedDetector d(rig,map); d.detect(f.I);
    cv::Mat g(f.I.getHeight(),f.I.getWidth(),CV_8U,f.I.bitmap),c; cv::cvtColor(g,c,cv::COLOR_GRAY2BGR); c=c*1.0;
    for(auto&o:d.observations()){ auto&q=o.features; 
      printf("%s obs %s (%.1f,%.1f) shape %d a %.1f b %.1f sig %.2f %.2f f %.1f+-%.1f d %.3f misfit %.4f str %u | %s\n",f.name.c_str(),o.id.c_str(),o.point.x(),o.point.y(),(int)o.outline.shape,o.outline.a,o.outline.b,std::sqrt(o.covariance(0,0)),std::sqrt(o.covariance(1,1)),q.frequency,q.frequencySigma,q.duty,q.misfit,q.stripes,o.remark.c_str());
      auto col=o.id.empty()?cv::Scalar(0,128,255):cv::Scalar(0,255,0);
      if(o.outline.shape==vpLampOutline::Shape::ellipse) cv::ellipse(c,cv::Point(o.outline.centre.x(),o.outline.centre.y()),cv::Size(o.outline.a,o.outline.b),o.outline.angle*180/M_PI,0,360,col,2);
      else for(int k=0;k<4;++k) cv::line(c,cv::Point(o.outline.corners[k].x(),o.outline.corners[k].y()),cv::Point(o.outline.corners[(k+1)%4].x(),o.outline.corners[(k+1)%4].y()),col,2);
      cv::circle(c,cv::Point(o.point.x(),o.point.y()),3,col,-1);
    }
    for(const auto&l:image["lamps_px"]){ cv::Point p(l.second[0].as<double>(),l.second[1].as<double>()); cv::drawMarker(c,p,cv::Scalar(0,0,255),cv::MARKER_CROSS,14,2);
      printf("   truth %s %d %d\n",l.first.as<std::string>().c_str(),p.x,p.y);
      cv::Mat big; cv::copyMakeBorder(c,big,half,half,half,half,cv::BORDER_CONSTANT); cv::Mat t=big(cv::Rect(p.x,p.y,2*half,2*half)).clone(); cv::resize(t,t,cv::Size(240,240),0,0,cv::INTER_AREA); cv::putText(t,f.name.substr(0,8)+" "+l.first.as<std::string>(),cv::Point(3,12),0,0.4,cv::Scalar(255,255,255)); tiles.push_back(t);}
  }
  while(tiles.size()%5) tiles.push_back(cv::Mat::zeros(240,240,CV_8UC3));
  std::vector<cv::Mat> rows; for(size_t i=0;i<tiles.size();i+=5){cv::Mat r; std::vector<cv::Mat> v(tiles.begin()+i,tiles.begin()+i+5); cv::hconcat(v,r); rows.push_back(r);} cv::vconcat(rows,all);
  cv::imwrite("/tmp/real.png",all);
}
